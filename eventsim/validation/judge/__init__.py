"""Judges an engine by its motion alone.  `judge` compares its places and contacts with those of the event-driven run.

    flights       free paths through samples, and where they turn
    told          who met whom, from the turns              surroundings   gaps between disks, distances of walls
    matching      which contact is which of the truth       outcome        restitution, masses, momentum of a contact
    faults        what is wrong, and what comes first       judgement      all of it
    previous      how long ago the contact before was
    gravity       the acceleration of free flights
    sizes         at which distance disks turn
    jumps         energy and momentum that no contact gives
    displaced     all disks elsewhere at once               overlaps       deeper than steps explain
    words         the verdict in sentences                  stepping       an engine that is a function
"""
