"""The positions that a page in JavaScript shows (engine.js wrote javascript.csv), judged with nothing else known of it."""

from pathlib import Path

import eventsim as es

here = Path(__file__).parent
scene = es.load_scene(here / "six.toml")
judged = es.validate(scene, trajectory=here / "javascript.csv")

print(judged)
print()
for fault in judged.judgement.faults[:3]:
    print(f"t = {fault.time:.3f}: {fault.kind}, disks {fault.disks}")
