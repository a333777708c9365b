# %% [markdown]
# # Time steps against events
#
# **Question.** Most programs move all disks by a small step, then look which overlap. What do they miss?
#
# **Prediction.** In a step dt a disk moves by v dt. Contacts shorter than that, glancing ones above all, pass unseen.
# Halving dt should halve the share that is missed. Guess the share for steps of a tenth of a radius.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # smaller steps
SAVE = "--save" in sys.argv  # pictures become files here
N = 150

# %% [markdown]
# **Run.** The same start, event-driven and with steps (the engine `stepped`: move, then resolve pairs that overlap and
# approach).

# %%
scene = es.gallery("gas", n=N)
radius, speed = scene.disks.radius[0], np.sqrt((scene.disks.velocity**2).sum(axis=1).mean())
UNTIL = 6 * radius / speed
exact = es.simulate(scene, until=UNTIL, log=True)
shares = np.array([1.0, 0.5, 0.2, 0.1, 0.05, 0.02] + ([0.01, 0.005] if FULL else []))
counts, places = [], []
for share in shares:
    stepped = es.simulate(scene, until=UNTIL, engine="stepped", dt=float(share * radius / speed), log=True)
    counts.append(stepped.counters.pair_contacts)
    places.append(np.sqrt(((stepped.state.position - exact.state.position) ** 2).sum(axis=1).mean()) / radius)

# %% [markdown]
# **Figure.**

# %%
missed = 1 - np.array(counts) / exact.counters.pair_contacts
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.loglog(shares, np.abs(missed), "o-", label="share of contacts, net")
axes.loglog(shares, places, "s-", label="error of places at the end / radius")
axes.set(xlabel="step, in radii of flight", ylabel="wrong by")
axes.legend()
plt.savefig("time_steps.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** Energy says nothing: these steps keep it to the last bits and lose contacts all the same.

# %%
print(f"{exact.counters.pair_contacts} contacts of pairs; with steps: {counts}")
print(f"large steps lose more than a tenth: {missed[0] > 0.1}; the smallest less than 5 %: {abs(missed[-1]) < 0.05}")
assert missed[0] > 0.1
assert abs(missed[-1]) < 0.05
assert abs(stepped.state.energy / exact.state.energy - 1) < 1e-9

# %% [markdown]
# **Exercise.** Places are wrong long before contacts are. Why does a step ten times smaller not make the places ten
# times better for long?
#
# **Answer.** A contact that is late by dt/2 turns the disks a little wrong, and every further contact multiplies that
# error. A step ten times smaller buys a fixed number of contacts per disk, and no more: the time until which places
# hold grows like $\ln(1/dt)$.

# %%
held = []
for share in (0.1, 0.01):
    ahead, follow = es.Simulation(scene), es.Simulation(scene, "stepped", dt=float(share * radius / speed))
    moment = 0.0
    while moment < UNTIL:
        moment += UNTIL / 100
        ahead.advance_to(moment)
        follow.advance_to(moment)
        if np.hypot(*(ahead.state.position - follow.state.position).T).max() > radius:
            break
    held.append(moment)
print(f"places hold for {held[0] / UNTIL:.2f} and {held[1] / UNTIL:.2f} of the run, not for ten times as long")
assert held[0] < held[1] < 10 * held[0]
