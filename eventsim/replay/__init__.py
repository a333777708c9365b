"""WHAT FOLLOWS FROM A LOG: the event log, the states between its rows, the flights of its disks, compact logs made full."""
