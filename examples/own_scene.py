"""A scene of one's own: two species fall onto a sloped wall; who reaches the right wall first?"""

import eventsim as es

light, heavy = (0.2, 1.0), (0.4, 8.0)  # radius, mass
species = [light, heavy, light, heavy, light, heavy]

scene = es.Scene(
    name="ramp",
    disks=es.Disks(
        position=[[1.0 + i, 8.0 + 0.25 * i] for i in range(6)],
        radius=[radius for radius, _ in species],
        mass=[mass for _, mass in species],
    ),
    domain=es.Box((12.0, 10.0)),
    walls=(es.Segment((0.0, 5.0), (9.0, 2.0), name="ramp"),),
    gravity=(0.0, -1.0),
)
run = es.simulate(scene, until=20.0, log=True)
log = run.log

print("walls that were hit:", ", ".join(sorted(set(log.wall_name[log.wall >= 0]))))
for disk in range(len(species)):
    hits = (log.a == disk) & (log.wall_name == "right")
    first = f"{log.time[hits][0]:.6f}" if hits.any() else "never"
    print(f"disk {disk} ({'heavy' if disk % 2 else 'light'}) reaches the right wall: {first}")
print(f"relative change of the energy below 1e-12: {abs(run.residuals.energy) < 1e-12}")
