# %% [markdown]
# # Maxwell's speeds and Boltzmann's H
#
# **Question.** All disks of a gas start with the same speed. How many contacts does it take until the speeds are
# Maxwell's, and can the gas find its way back?
#
# **Prediction.** Boltzmann: $H = \sum p \ln p$ over cells of velocities falls until $p$ is Maxwell's. Guess the number
# of contacts per disk: 3, 30 or 300?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es

FULL = "--full" in sys.argv  # more disks
SAVE = "--save" in sys.argv  # pictures become files here
N = 2000 if FULL else 400

# %% [markdown]
# **Run.** A gas of N disks, speed 1, mass 1: $kT = 1/2$.

# %%
gas = es.gallery("gas", n=N)
speeds = np.hypot(*gas.disks.velocity.T)
disks = es.Disks(gas.disks.position, gas.disks.velocity / speeds[:, None], gas.disks.radius)
scene = es.Scene(disks, gas.domain, name="equal speeds")
run = es.simulate(scene, events=10 * N, log=True)
times = np.linspace(0, run.time, 60)
contacts = 2 * np.searchsorted(run.log.time[run.log.kinds == "pair"], times) / N  # per disk; a contact has two


def h(velocity):
    """Boltzmann's H of the speeds squared, which in two dimensions are exponential at the end."""
    counts, edges = np.histogram((velocity**2).sum(axis=1), bins=np.linspace(0, 8, 32))  # 1 lies within a bin
    p = counts / counts.sum()
    return np.sum(p[p > 0] * np.log(p[p > 0] / np.diff(edges)[p > 0]))


found = [run.state_at(t).velocity for t in times]

# %% [markdown]
# **Figure.**

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
left.plot(contacts, [h(v) for v in found])
left.axhline(-1, color="grey", lw=0.8)  # of exp(-x): the mean of ln p is -1
left.set(xlabel="contacts per disk", ylabel="H", title="H falls, and stays")
right.hist(np.hypot(*np.concatenate(found[40:]).T), bins=40, density=True, alpha=0.6)
v = np.linspace(0, 3, 200)
right.plot(v, 2 * v * np.exp(-(v**2)), label="Maxwell, kT = 1/2")
right.set(xlabel="speed", ylabel="density", title="speeds in the last third")
right.legend()
plt.savefig("maxwell.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** Maxwell in two dimensions has $\langle v^4\rangle/\langle v^2\rangle^2 = 2$ (a little less at fixed
# energy); equal speeds have 1. After some ten contacts per disk the gas is there.

# %%
ratio = [np.mean((w**2).sum(axis=1) ** 2) / np.mean((w**2).sum(axis=1)) ** 2 for w in found]
late = np.mean([r for r, c in zip(ratio, contacts, strict=True) if c > 10])
print(f"<v^4> / <v^2>^2: {ratio[0]:.3f} at the start, {late:.3f} late, Maxwell 2")
assert abs(ratio[0] - 1) < 1e-12
assert abs(late / 2 - 1) < 0.05

# %% [markdown]
# **Exercise (Loschmidt).** Stop after one contact per disk, turn all velocities round, and go on for as long. What
# happens to H? Why does it not work after 50 contacts per disk?
#
# **Answer.** Every contact is undone in turn, and all speeds are equal again: H rises. The law of H is one of likely
# starts. Each contact multiplies errors of the last bits; after some 30 contacts per disk nothing is left of the way
# back.

# %%
forth = es.Simulation(scene)
forth.advance_to(float(times[np.searchsorted(contacts, 1.0)]))
turned = es.Simulation(scene.begun_at(0.0, es.Disks(forth.state.position, -forth.state.velocity, scene.disks.radius)))
turned.advance_to(forth.time)
back = np.hypot(*turned.state.velocity.T)
print(f"H: {h(found[0]):.3f} at the start, {h(forth.state.velocity):.3f} at the turn, {h(turned.state.velocity):.3f} at the end")
print(f"all speeds are 1 again to 1e-9: {np.abs(back - 1).max() < 1e-9}")
assert h(forth.state.velocity) < h(found[0])
assert np.abs(back - 1).max() < 1e-9
