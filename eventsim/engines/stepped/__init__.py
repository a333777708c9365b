"""Stepped engines: time in steps of equal length, contacts looked for after each of them.

    frames     the per-frame engine of the course project, rule by rule
    stepped    a fair fixed-step engine; located within the step if asked
    penalty    soft disks, springs, velocity Verlet
    chipmunk   the Chipmunk engine through pymunk

All keep the contract of `engines.base`. They are what event-driven runs are validated against: see `validate`.
"""
