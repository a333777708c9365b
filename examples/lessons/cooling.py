# %% [markdown]
# # Cooling and collapse: contacts that take energy
#
# **Question.** Grains lose energy at every contact. How does a gas of them cool, and can they stop in finite time?
#
# **Prediction.** A contact takes the share $1-e^2$ of the energy with which two disks approach each other along their
# normal, which is $T$ on average. After s contacts per disk, each shared by two, the temperature is
# $T_0 \exp(-(1-e^2)s/2)$ (Haff). For three disks on a line: can there be infinitely many contacts?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # more disks
SAVE = "--save" in sys.argv  # pictures become files here
N = 1000 if FULL else 200
E = 0.9

# %% [markdown]
# **Run.**

# %%
scene = es.gallery("cooling", n=N, restitution=E)
run = es.simulate(scene, events=6 * N, log=True)
times = np.linspace(0, run.time, 50)
s = 2 * np.searchsorted(run.log.time, times) / N
temperature = np.array([run.state_at(t).energy for t in times])
temperature /= temperature[0]
haff = np.exp(-(1 - E**2) * s / 2)

# %% [markdown]
# **Figure.**

# %%
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.semilogy(s, temperature, "o", ms=4, label="run")
axes.semilogy(s, haff, label="Haff")
axes.set(xlabel="contacts per disk", ylabel="temperature / at the start")
axes.legend()
plt.savefig("cooling.png") if SAVE else plt.show()

# %% [markdown]
# **Check.**

# %%
off = np.abs(temperature / haff - 1).max()
print(f"cooled to {temperature[-1]:.2f} of the start; Haff within 8 %: {off < 0.08}")
assert off < 0.08

# %% [markdown]
# **Exercise.** Three disks on a line: the outer ones close in on the one between. Find by trial the restitution below
# which they never part.
#
# **Answer.** $7 - 4\sqrt 3 = 0.0718$: below it the velocities of approach shrink by a fixed share each round, and the
# times of contacts pile up. The run stops and says so; it does not guess what comes after infinitely many contacts.

# %%
for e in (0.08, 0.075, 0.07, 0.05):
    three = es.simulate(es.gallery("collapse", restitution=e))
    found = f"{three.counters.events} contacts" if three.stopped == "quiet" else "more contacts than can be told"
    print(f"e = {e}: {found}, stopped: {three.stopped}")
    assert (three.stopped == "quiet") == (e > 7 - 4 * np.sqrt(3))
