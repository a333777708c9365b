# %% [markdown]
# # Pressure from contacts
#
# **Question.** How much more than an ideal gas do hard disks press, if they cover 10, 30, 50 % of the plane?
#
# **Prediction.** In an ideal gas $pV = NkT$: $Z = pV/NkT = 1$. Disks exclude each other from part of the plane, so Z
# grows with the packing fraction $\eta$. Guess Z at $\eta = 0.5$: 1.5, 2, 4 or 10?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # smaller error bars
SAVE = "--save" in sys.argv  # pictures become files here
EVENTS = 200_000 if FULL else 6_000

# %% [markdown]
# **Run.** Each contact carries the momentum $\Delta p$ across the distance of the centres. Their sum per time is the
# excess pressure (the virial): no walls are needed. `measure=True` adds it up while the run goes on, with error bars
# from blocks.

# %%
etas = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5])


def compressibility(eta):
    scene = es.gallery("periodic-fluid", n=100, packing_fraction=float(eta))
    return es.simulate(scene, events=EVENTS, measure=True).measures["Z"]


found = [compressibility(eta) for eta in etas]


# %% [markdown]
# **Figure.** The curve is Henderson's equation of state, $Z = (1 + \eta^2/8)/(1-\eta)^2$ (Mol. Phys. 30, 971 (1975),
# doi:10.1080/00268977500102511).


# %%
def henderson(eta):
    return (1 + eta**2 / 8) / (1 - eta) ** 2


figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
line = np.linspace(0, 0.55, 100)
axes.plot(line, henderson(line), label="Henderson")
axes.axhline(1, color="grey", lw=0.8, label="ideal gas")
axes.errorbar(etas, [z.value for z in found], [z.error for z in found], fmt="o", ms=4, capsize=3, label="contacts")
axes.set(xlabel="packing fraction", ylabel="Z = pV / NkT")
axes.legend()
plt.savefig("pressure.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** Bars of 100 disks, and the equation itself is good to about one percent.

# %%
for eta, z in zip(etas, found, strict=True):
    theory = henderson(eta)
    print(f"eta {eta:.2f}: Z {z.value:.3f} +- {z.error:.3f}, theory {theory:.3f}: {(z.value - theory) / z.error:+.1f} sigma")
    assert abs(z.value - theory) < 4 * z.error + 0.02 * theory

# %% [markdown]
# **Exercise.** At which packing fraction do disks press twice as hard as an ideal gas? Check it.
#
# **Answer.** $(1+\eta^2/8) = 2(1-\eta)^2$ gives $\eta = 0.289$.

# %%
root = np.roots([2 - 1 / 8, -4, 1]).min().real
double = compressibility(root)
print(f"eta = {root:.3f}: Z {double.value:.3f} +- {double.error:.3f}, theory 2")
assert abs(double.value - 2) < 4 * double.error + 0.04
