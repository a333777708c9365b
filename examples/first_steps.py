"""First steps: run a built-in scene, read its log, ask where the disks are at any time."""

import eventsim as es

scene = es.gallery("two-disks")
run = es.simulate(scene, log=True)

print(f"{len(run.log)} events until t = {run.time:g}; stopped by {run.stopped!r}\n")

print("event  time  what happens")
for row in range(4):
    disk, other = run.log.a[row], run.log.b[row]
    partner = f"disk {other}" if other >= 0 else f"wall {run.log.wall_name[row]}"
    print(f"{run.log.event[row]:5d}  {run.log.time[row]:4g}  disk {disk} meets {partner}")

print("\n time  disk 0  disk 1")
for time in (0.0, 1.0, 2.0, 3.0, 4.5, 6.0):
    state = run.state_at(time)
    print(f"{time:5g}  {state.position[0, 0]:6g}  {state.position[1, 0]:6g}")

print(f"\nrelative change of the energy: {run.residuals.energy:g}")
