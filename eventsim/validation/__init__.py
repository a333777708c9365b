"""ENGINES AGAINST EACH OTHER AND AGAINST THEORY.

    truth        the event-driven run, and until when it can be believed
    competitors     the stepped engines that take part, under their names
    contacts     contact by contact: found, missed, doubled, spurious
    compare      one scene, all engines, all steps          verdict   what it comes to, in sentences
    precision    error against elapsed time                 chart     all scenes of a chart
    advantages   event-driven against each other engine     conclusions   five questions, answered
    plain        the reference engine without careful contact times
    stress/      scenes where methods fail
"""
