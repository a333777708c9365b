# %% [markdown]
# # Galperin's billiard: contacts that count to pi
#
# **Question.** A light disk rests between a wall and a heavy one, which comes in. How often do disks and wall meet, if
# the heavy disk has 100, 10 000, 1 000 000 times the mass?
#
# **Prediction.** Energy keeps the point $(\sqrt{M} V, \sqrt{m} v)$ on a circle. Each contact moves it along the circle
# by an angle; how many steps fit into half a turn? Guess the counts before you run.

# %%
import math
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # two digits more
SAVE = "--save" in sys.argv  # pictures become files here

# %% [markdown]
# **Run.**

# %%
runs = {100**k: es.simulate(es.gallery("galperin", mass_ratio=100**k), log=True) for k in range(6 if FULL else 4)}
counts = {ratio: run.counters.events for ratio, run in runs.items()}
for ratio, count in counts.items():
    print(f"mass ratio {ratio:12,d}: {count:8,d} contacts")

# %% [markdown]
# **Figure.** The velocities of the run with the ratio 100, scaled by the roots of the masses: a walk on a circle.

# %%
run = runs[100]
moments = np.concatenate([[run.start_time], 0.5 * (run.log.time[1:] + run.log.time[:-1]), [run.time + 1]])
scaled = np.array([run.state_at(min(t, run.time)).velocity[:, 0] for t in moments]) * np.sqrt(run.scene.disks.mass)
figure, axes = plt.subplots(figsize=(5, 5), layout="constrained")
axes.plot(scaled[:, 1], scaled[:, 0], "o-", ms=4, lw=0.7)
axes.set(xlabel=r"$\sqrt{M}\,V$ (heavy)", ylabel=r"$\sqrt{m}\,v$ (light)", aspect="equal")
axes.set_title("31 contacts: each is a chord of the same circle", fontsize=10)
plt.savefig("galperin.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** A pair and a wall contact together turn the point by $2\theta$, $\theta = \arctan\sqrt{m/M}$. There are
# $\lceil\pi/\theta\rceil - 1$ contacts.

# %%
for ratio, count in counts.items():
    predicted = math.ceil(math.pi / math.atan(math.sqrt(1 / ratio)) - 1e-9) - 1
    print(f"{count:8,d} found, {predicted:8,d} predicted")
    assert count == predicted
spread = np.ptp(np.hypot(*scaled.T)) / scaled.max()
print(f"on one circle to 1e-12: {spread < 1e-12}")
assert spread < 1e-12

# %% [markdown]
# **Exercise.** What is the largest mass ratio with five contacts, and why is floor(pi/theta) wrong there?
#
# **Answer.** Ratio 3: $\theta = \arctan(1/\sqrt 3) = \pi/6$, so $\pi/\theta = 6$ exactly. The sixth contact would be
# one at which the disks move with the same velocity: they do not approach, so it is none. Beyond 3 it is one.

# %%
five = es.simulate(es.gallery("galperin", mass_ratio=3)).counters.events
print(f"mass ratio 3: {five} contacts")
assert five == 5
