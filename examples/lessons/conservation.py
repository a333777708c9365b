# %% [markdown]
# # Conservation: what a contact cannot change
#
# **Question.** A cue disk runs into fifteen disks at rest. Sixteen velocities change at once, and walls come into play
# later. Which sums over all disks do the contacts of disks leave alone, and which do walls leave alone?
#
# **Prediction.** Think of $\sum m v^2/2$ and of $\sum m v$: which of them can a contact of two disks change, and which a
# contact with a wall? Write down your guess for the momentum along x after 3 time units before you go on: more than at
# the start, less, or negative?

# %%
import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # more events and sharper checks
SAVE = "--save" in sys.argv  # pictures become files here

# %% [markdown]
# **Run.** The log has one row per contact: who met, where, and the momentum exchanged.

# %%
run = es.simulate(es.gallery("break"), until=20.0 if FULL else 3.0, log=True)
times = np.linspace(run.start_time, run.time, 200)
states = [run.state_at(t) for t in times]
energy = np.array([state.energy for state in states])
momentum = np.array([state.momentum[0] for state in states])

# What the left and right walls gave: to the right at the left one, to the left at the right one.
log, sign = run.log, {"left": 1.0, "right": -1.0}
given = np.array(
    [sign.get(wall, 0.0) * impulse for wall, impulse in zip(log.wall_name, log.rows["impulse"], strict=True)]
)
by_walls = momentum[0] + np.array([given[log.time <= t].sum() for t in times])

# %% [markdown]
# **Figure.**

# %%
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(7, 5), layout="constrained")
above.plot(times, energy, label="all disks")
above.plot(
    times, [0.5 * np.sum(s.velocity[0] ** 2) * run.scene.disks.mass[0] for s in states], label="the cue disk alone"
)
above.set(ylabel="kinetic energy", ylim=(0, None))
above.legend()
below.plot(times, momentum, label="sum of m v")
below.plot(times, by_walls, "k:", label="start + what the walls gave")
below.set(xlabel="time", ylabel="momentum along x")
below.legend()
plt.savefig("conservation.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** An elastic contact keeps $\sum m v^2/2$. Contacts of disks exchange momentum, so $\sum m v$ changes at walls
# only: by exactly what the walls exchange.

# %%
drift = np.abs(energy / energy[0] - 1).max()
gap = np.abs(momentum - by_walls).max() / np.abs(momentum).max()
print(f"{len(log)} contacts; energy keeps to 1e-12 of itself: {drift < 1e-12}")
print(f"momentum is what the walls gave, to 1e-12: {gap < 1e-12}")
assert drift < 1e-12
assert gap < 1e-12

# %% [markdown]
# **Exercise.** Now contacts have a restitution of 0.9. What does one contact of two equal disks take from the energy,
# in terms of the momentum $J$ that it exchanges? Check the sum over a run.
#
# **Answer.** With the reduced mass $\mu$ and the speed of approach $u$: $J = (1+e)\mu u$, and the loss is $(1-e^2)\mu
# u^2/2 = \frac{1-e}{1+e} J^2/2\mu$. At a wall $\mu$ is the mass of the disk.

# %%
e = 0.9
lossy = es.simulate(replace(es.gallery("gas", n=40), restitution=e), events=2_000 if FULL else 300, log=True)
mass = lossy.scene.disks.mass[0]
mu = np.where(lossy.log.kinds == "pair", mass / 2, mass)
loss = np.sum((1 - e) / (1 + e) * lossy.log.rows["impulse"] ** 2 / (2 * mu))
lost = lossy.state_at(lossy.start_time).energy - lossy.state.energy
print(f"lost {lost:.6f}, by the formula {loss:.6f}")
assert abs(lost / loss - 1) < 1e-10
