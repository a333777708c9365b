"""A user's script, as a strict type checker sees it."""

import numpy as np

import eventsim as es

scene = es.Scene(
    disks=es.Disks(position=[(0.5, 0.5), (1.5, 0.5)], velocity=[(1, 0), (0, 0)], radius=0.1, mass=[1, 2]),
    domain=es.Box((2, 1)),
    walls=(es.Segment((1.0, 0.0), (1.0, 0.25), name="post"),),
    restitution={"pair": 0.9},
)
scene.save("scene.toml")
again = es.load_scene("scene.toml", ["restitution=0.8"])
gas = es.gallery("gas", n=20)
floor = {"bottom": {"restitution": 0.5}}
fall = es.Scene(es.Disks([(0.5, 0.5)], radius=0.1), es.Box([2, 1], walls=floor), gravity=np.array([0, -1]))

run = es.simulate(scene, until=4.0, log=True, measure=True)
speed: float = float((run.state.velocity**2).sum())
energy: float = run.state.energy
px, py = run.state.momentum
print(run.counters.events, run.stopped, run.residuals.energy, speed, energy, px, py)
if run.has_measures:
    print(run.measures["collision_rate"].value, run.measures.keys(), run.measures.table())
log = run.log
first = log[0]
print(run.has_log, first.kind, first.xa, len(log[2:5]), log.time[0], log.digest())
log.save("log.csv")
frame = log.to_pandas()
print(frame)
axes = run.plot("speeds")
print(axes)
run.animate("run.gif", trails=True)

with es.Simulation(gas, engine="reference", log="gas.csv", checkpoint="gas.ckpt") as sim:
    rows = sim.step()
    sim.advance_to(0.5)
    sim.set_velocity(0, (1.0, 0.0))
    sim.set_velocity(np.int64(1), sim.state.velocity[0])
    print(len(rows), sim.time, sim.state.position.shape)
resumed = es.resume("gas.ckpt", until=1.0)
read = es.load_log("gas.csv")
print(resumed.time, read.scene, read.measure().keys(), read.plot("speeds"))


try:
    es.load_scene("nowhere.toml")
except es.SceneError as error:
    print(error.problems)
