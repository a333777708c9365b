"""An oracle of its own: scenes followed in 60 to 1000 digits, and runs of the engines judged row by row.

It shares no line with `eventsim` beyond reading scenes; what it knows of physics it derives anew.  In the order of
reading:

* `digits`: the numbers; `table`: a scene in them.
* `roots`: isolated roots of polynomials; `search`: contact times from them.
* `impact`: what contacts do; `loop`: the earliest contact of all, again and again: a `Story`.
* `doubt`: how far rounding and its growth may have taken floats from it.
* `judge`: the verdict on an engine's log; `families`: random scenes; `command`: many of them.
"""
