# %% [markdown]
# # Brownian motion: one heavy disk among many light ones
#
# **Question.** A disk ten times as heavy starts at rest among small ones. How much energy does it have in the end?
#
# **Prediction.** Equipartition: each disk has $kT$ on average in two dimensions, whatever its mass. So its speed is
# $\sqrt{10}$ times less than that of the small ones. Guess how it gets there: at once, or after how many knocks?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # more runs of it
SAVE = "--save" in sys.argv  # pictures become files here
SEEDS = 200 if FULL else 24
UNTIL = 100.0

# %% [markdown]
# **Run.** An ensemble: the same start of the heavy disk, other places and velocities of the small ones.

# %%
times = np.linspace(0, UNTIL, 101)


def story(mass, seed, times):
    run = es.simulate(es.gallery("brownian", n=60, mass=mass, radius=1.5, seed=seed), until=times[-1], log=True)
    states = [run.state_at(t) for t in times]
    return np.array([s.velocity[0] for s in states]), np.array([s.position[0] for s in states])


stories = [story(10.0, seed, times) for seed in range(SEEDS)]
velocity, place = (np.array(part) for part in zip(*stories, strict=True))
energy = 0.5 * 10.0 * (velocity**2).sum(axis=2)

# %% [markdown]
# **Figure.**

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for way in place[:3]:
    left.plot(*way.T, lw=1)
left.set(xlabel="x", ylabel="y", aspect="equal", title="three ways of the heavy disk")
right.plot(times, energy.mean(axis=0), label=f"mean of {SEEDS} runs")
right.axhline(1, color="grey", label="kT")
right.set(xlabel="time", ylabel="its kinetic energy", ylim=(0, None))
right.legend()
plt.savefig("brownian.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** It starts with nothing, and has $kT = 1$ in the second half (the bath has given a little: 60 disks at
# fixed energy).

# %%
late = energy[:, times > UNTIL / 2].mean(axis=1)
mean, error = late.mean(), late.std(ddof=1) / np.sqrt(SEEDS)
near = abs(mean - 60 / 61) < 4 * error
print(f"energy at the start {energy[:, 0].mean():g}; late within four bars of kT: {near}")
assert energy[:, 0].max() == 0
assert near

# %% [markdown]
# **Exercise.** Make it four times as heavy. What changes: its energy, its speed, or the time that it takes?
#
# **Answer.** The energy is the same $kT$; the mean square of its velocity is a quarter. The kicks are as strong as
# before, so the time to get there is four times as long.

# %%
early = times <= 10
heavy = np.array([story(40.0, seed, times[early])[0] for seed in range(SEEDS)])
slower = (0.5 * 40.0 * (heavy**2).sum(axis=2)).mean() / energy[:, early].mean()
print(f"in the beginning it has a smaller share of the energy than the lighter one: {slower < 0.8}")
assert slower < 0.8
