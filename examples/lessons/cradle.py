# %% [markdown]
# # Newton's cradle, and contacts at the same instant
#
# **Question.** k disks run into a row of disks that touch. How many leave? And what if one disk meets two others at
# exactly the same time: who comes first?
#
# **Prediction.** Momentum and energy alone allow many outcomes for five disks. Write down how many leave for k = 1, 2,
# 3, and one other outcome that keeps both sums for k = 2.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # longer rows
SAVE = "--save" in sys.argv  # pictures become files here

# %% [markdown]
# **Run.** Disks of diameter 1 on a line; walls send the last ones back.

# %%
n = 9 if FULL else 5
runs = {k: es.simulate(es.gallery("newton-cradle", n=n, moving=k), until=16.0, log=True) for k in range(1, n)}
after = {}
for k, run in runs.items():
    # The last of the contacts between disks before a wall is met: then the row has answered.
    met_wall = np.argmax(run.log.kinds == "wall")
    after[k] = run.state_at(0.5 * (run.log.time[met_wall - 1] + run.log.time[met_wall])).velocity[:, 0]
    print(f"{k} in: velocities after  {np.round(after[k], 12) + 0.0}")

# %% [markdown]
# **Figure.** Places against time for k = 2.

# %%
axes = plt.figure(figsize=(6, 5), layout="constrained").gca()
runs[2].plot("space-time", ax=axes)
plt.savefig("cradle.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** As many leave as came, with the same speed, and all others stop. Equal masses exchange velocities, one
# pair after the other.

# %%
for k, velocity in after.items():
    assert np.abs(velocity - np.r_[np.zeros(n - k), np.ones(k)]).max() < 1e-12
print("as many leave as came in")

# %% [markdown]
# **Exercise.** One disk with speed 1 meets two touching disks at rest, both at the same instant, along normals with
# cosine 0.8 to its way. One pair after the other would give a result that depends on the order. Find the symmetric one
# from momentum and energy.
#
# **Answer.** Let the two leave with speed u along their normals; $c = 0.8$. Momentum: $v' = 1 - 2uc$. Energy: $1 =
# v'^2 + 2u^2$. So $u = 2c/(1 + 2c^2) = 40/57$ and $v' = -7/57$. The engine resolves such contacts together (`joint` in
# the log), whatever the order of disks.

# %%
tie = es.simulate(es.gallery("tie"), log=True)
c = 0.8
u = 2 * c / (1 + 2 * c**2)
left = tie.state.velocity
print(f"striker {left[0, 0]:.6f}, the two {np.hypot(*left[1]):.6f} and {np.hypot(*left[2]):.6f}")
print(f"by hand {1 - 2 * u * c:.6f}, {u:.6f}")
assert abs(left[0, 0] - (1 - 2 * u * c)) < 1e-12
assert np.abs(np.hypot(*left[1:].T) - u).max() < 1e-12
