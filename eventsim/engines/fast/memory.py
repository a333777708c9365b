"""How kernels reach memory and registers: by instructions of the processor, or as `compiled` says in plain Python."""

from __future__ import annotations

from typing import Any

from eventsim.compiler import is_interpreted

chosen: Any
if is_interpreted():
    from eventsim.engines.fast import plain_python as chosen

    lanes: Any = chosen
else:
    from eventsim.engines.fast import numba_lanes as lanes
    from eventsim.engines.fast import numba_memory as chosen

pointer, either, real, word, store = chosen.pointer, chosen.either, chosen.real, chosen.word, chosen.store
put_line, prefetch = chosen.put_line, chosen.prefetch
lanes_work, gather_disks, contact_of_eight = lanes.lanes_work, lanes.gather_disks, lanes.contact_of_eight
