"""The clock jumps to a contact after a long spell, and back where a stop comes before it: the log is that of one run."""

import pytest

import eventsim as es
from eventsim.scene.stage import stage_of

LONE = es.Scene(es.Disks([(0.0, 0.0), (5e6, 0.1)], [(1.0, 0.0), (0.0, 0.0)], 0.5), es.Open())


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_stops_shortly_before_a_late_contact_change_nothing(engine):
    whole = es.simulate(LONE, until=6e6, engine=engine, log=True)
    (due,) = whole.log.time
    epoch = stage_of(LONE).epoch_length
    sim = es.Simulation(LONE, engine=engine)
    for early in (2000.0, 40.0, 3.0, 1.5, 1.0, 0.7, 0.3, 1e-3, 1e-9):
        if due - early * epoch > sim.time:
            sim.advance_to(due - early * epoch)
            assert sim.counters.events == 0
    sim.advance_to(6e6)
    assert sim.log.time.tolist() == [due]
    assert sim.state.velocity.tolist() == whole.state.velocity.tolist()
