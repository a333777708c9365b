# %% [markdown]
# # Free paths and diffusion
#
# **Question.** How far does a disk fly between two contacts, and how does it spread after many?
#
# **Prediction.** A disk of diameter d sweeps a strip of width 2d. With n disks per area the mean free path is about
# $1/(2dn)$; since the others move, too, it is shorter by $\sqrt 2$. What happens to it if the density doubles: half,
# more or less than half?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # smaller error bars
SAVE = "--save" in sys.argv  # pictures become files here
EVENTS = 300_000 if FULL else 8_000

# %% [markdown]
# **Run.**

# %%
scene = es.gallery("periodic-fluid", n=144, packing_fraction=0.2)
run = es.simulate(scene, events=EVENTS, log=True, measure=True)
path, diffusion = run.measures["mean_free_path"], run.measures["diffusion"]

# %% [markdown]
# **Figure.** Free paths first: nearly exponential. Then the mean square displacement: first $\langle v^2\rangle t^2$,
# then $4Dt$.

# %%
run.plot("free-paths")
run.plot("msd")
plt.savefig("free_paths.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** Enskog corrects the density by the contact value $\chi = (1 - 7\eta/16)/(1-\eta)^2$, the chance to find a
# neighbour close by: $\lambda = 1/(2\sqrt 2\, d\, n\, \chi)$.


# %%
def enskog(eta, diameter):
    n = eta / (np.pi * diameter**2 / 4)
    return 1 / (2 * np.sqrt(2) * diameter * n * (1 - 7 * eta / 16) / (1 - eta) ** 2)


theory = enskog(0.2, 2 * scene.disks.radius[0])
near = abs(path.value - theory) < 4 * path.error + 0.03 * theory
print(f"mean free path within bars and 3 % of Enskog: {near}; it diffuses: {diffusion.value > 0}")
assert near
assert diffusion.value > 0

# %% [markdown]
# **Exercise.** Measure the free path at twice the density. Is it half?
#
# **Answer.** Less than half: $\chi$ has grown. $\lambda(0.4)/\lambda(0.2) = \chi(0.2)/(2\chi(0.4)) = 0.31$ at equal
# diameters.

# %%
dense = es.gallery("periodic-fluid", n=144, packing_fraction=0.4)
shorter = es.simulate(dense, events=EVENTS, measure=True).measures["mean_free_path"]
ratio = (shorter.value / dense.disks.radius[0]) / (path.value / scene.disks.radius[0])
expected = enskog(0.4, 1) / enskog(0.2, 1)
print(
    f"ratio less than a half: {ratio < 0.5}; Enskog says {expected:.3f}, within 8 %: {abs(ratio / expected - 1) < 0.08}"
)
assert abs(ratio / expected - 1) < 0.08
