# %% [markdown]
# # Billiards: Sinai, the stadium, the ellipse
#
# **Question.** Two points start a billionth apart. In which of these tables do they part?
#
# **Prediction.** A convex post scatters, like a mirror ball. The stadium has walls that focus, and so has the ellipse.
# Which of the three are chaotic?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import eventsim as es
from eventsim.measure import study

FULL = "--full" in sys.argv  # longer paths
SAVE = "--save" in sys.argv  # pictures become files here
APART = 1e-9

# %% [markdown]
# **Run.** In each table two points of mass 0: they meet walls, and not each other.


# %%
def pair(domain, walls, place, velocity, post=None):
    places = [place, (place[0] + APART, place[1])] + ([post] if post else [])
    speeds = [velocity, velocity] + ([(0, 0)] if post else [])
    disks = es.Disks(places, speeds, radius=[0, 0] + ([0.25] if post else []), mass=[0, 0] + ([np.inf] if post else []))
    return es.Scene(disks, domain, walls)


stadium = [
    es.Segment((-1, -1), (1, -1)),
    es.Segment((-1, 1), (1, 1)),
    es.Arc((1, -1), (2, 0), (1, 1)),
    es.Arc((-1, 1), (-2, 0), (-1, -1)),
]
tables = {
    "Sinai": pair(es.Periodic((1, 1)), [], (0.1, 0.07), (0.6, 0.8), post=(0.5, 0.5)),
    "stadium": pair(es.Open(), stadium, (0.1, 0.07), (0.6, 0.8)),
    "ellipse": pair(es.Open(), [es.Ellipse(center=(0, 0), semi_axes=(2, 1))], (0.1, 0.07), (0.6, 0.8)),
}
UNTIL = 80.0
times = np.linspace(0, UNTIL, 301)
distance = {}
for name, scene in tables.items():
    run = es.simulate(scene, until=UNTIL, log=True)
    apart = np.array([np.subtract(*run.state_at(t).position[:2]) for t in times])
    if name == "Sinai":
        apart -= np.round(apart)  # the nearest image on the torus
    distance[name] = np.hypot(*apart.T)

# %% [markdown]
# **Figure.**

# %%
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for name, values in distance.items():
    axes.semilogy(times, values, label=name)
axes.set(xlabel="time", ylabel="distance of the two points", title="who parts exponentially is chaotic")
axes.legend()
plt.savefig("billiards-paths.png") if SAVE else plt.show()

# %% [markdown]
# **Check.** Sinai's points and those in the stadium are lost; in the ellipse the distance grows at most like the time.
# Between contacts with the ellipse the product of the angular momenta about the foci stays what it was.

# %%
for name, values in distance.items():
    print(f"{name:8s} the distance has grown by more than a million: {values.max() > 1e6 * APART}")
assert [values.max() > 1e6 * APART for values in distance.values()] == [True, True, False]

focus = np.sqrt(2**2 - 1**2)
run = es.simulate(tables["ellipse"], events=2000, log=True)
rows = run.log.rows[run.log.a == 0]
x, y = rows["xa"], rows["ya"]
product = ((x - focus) * rows["vya"] - y * rows["vxa"]) * ((x + focus) * rows["vya"] - y * rows["vxa"])
print(f"the product of angular momenta holds to 1e-9: {np.ptp(product) < 1e-9 * abs(product).max()}")
assert np.ptp(product) < 1e-9 * abs(product).max()

# %% [markdown]
# **How fast do they part?** From contact to contact the distance grows by a factor $e^{\lambda}$. Between two posts of radius $R$
# a point flies a way of order $1/R$. A contact turns two neighbours apart by an angle of order $1/R$ times their distance. So
# $\lambda$ grows like $-2 \ln R$: the smaller the post, the more each contact does. The constant that comes with it is
# $1 - 4 \ln 2 + 27\,\zeta(3) / 2\pi^2$, but for terms of order $R \ln^2 R$ (Dahlqvist, Nonlinearity 10, 159 (1997)).
# The tangent map along the log gives $\lambda$ itself.

# %%
radii, zeta3 = np.array([0.02, 0.05, 0.1, 0.2, 0.3]), 1.2020569031595943
measured = []
for radius in radii:
    disks = es.Disks([(0, 0), (0.5, 0.4)], [(0, 0), (np.cos(0.7), np.sin(0.7))], radius=[radius, 0], mass=[np.inf, 0])
    run = es.simulate(es.Scene(disks, es.Periodic((1, 1))), events=20_000 if FULL else 500, log=True)
    measured.append(study(run.log, "lyapunov", 1)["lyapunov_tracer_1_per_contact"])
values, bars = (np.array([getattr(entry, key) for entry in measured]) for key in ("value", "error"))


def small_posts(radius):
    return -2 * np.log(radius) + 1 - 4 * np.log(2) + 27 * zeta3 / (2 * np.pi**2)


figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
line = np.geomspace(0.015, 0.4, 50)
axes.plot(line, small_posts(line), color="0.5", label="asymptote for small posts")
axes.errorbar(radii, values, bars, fmt="o", label="tangent map along the log")
axes.set(xscale="log", xlabel="radius of the post", ylabel="Lyapunov exponent per contact", title="smaller posts do more")
axes.set_xticks(radii, [f"{radius:g}" for radius in radii], minor=False)
axes.minorticks_off()
axes.legend()
plt.savefig("billiards-posts.png") if SAVE else plt.show()

off = np.abs(values - small_posts(radii))
print(f"off the asymptote by less than R ln(R)^2, but for bars: {np.all(off < radii * np.log(radii) ** 2 + 3 * bars)}")
assert np.all(off < radii * np.log(radii) ** 2 + 3 * bars)

# %% [markdown]
# **Exercise.** The mean free path of a chaotic table with area A and perimeter P is $\pi A/P$. What is it for Sinai's
# table with a post of radius 0.25 in a unit torus? Measure it.
#
# **Answer.** $\pi (1 - \pi R^2)/2\pi R = (1 - \pi/16)/0.5 = 1.607$.

# %%
run = es.simulate(es.gallery("sinai", n=1), events=200_000 if FULL else 10_000)
path, theory = run.time / run.counters.events, (1 - np.pi / 16) / 0.5
bound = 4 / np.sqrt(run.counters.events)
print(f"pi A / P = {theory:.4f}; measured within {bound:.1%}: {abs(path / theory - 1) < bound}")
assert abs(path / theory - 1) < bound
