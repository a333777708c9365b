"""WHERE METHODS FAIL: a catalogue of hard scenes, each with its oracle; every engine on every scene; verdicts."""
