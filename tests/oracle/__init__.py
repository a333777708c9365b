"""An oracle of its own: scenes followed in 60 to 1000 digits, and runs of the engines judged row by row.

It shares no line with `eventsim` beyond reading scenes; what it knows of physics it derives anew.  In the order of reading:

* `digits`: the numbers.  `table`: a scene in them.
* `roots`: isolated roots of polynomials.  `search`: contact times from them.
* `impact`: what contacts do.  `doubt`: how far rounding and its growth may have taken floats from the truth.
* `story`: what is told.  `state`: what changes.  `order`: what comes first, and whether floats can tell.
* `contact`, `rest`, `start`: what happens.  `loop`: the earliest event of all, again and again.
* `judge`: the verdict on an engine's log.  `families`: random scenes.  `command`: many of them, and a table.

To add a wall shape: a class in `table`, its gap as a polynomial in `search`, its normal and bend in `state`.

`python -m tests.oracle --list` names the families; `--family NAME --scenes N --seed S` judges; `--first K --scenes 1 --show`
tells one scene row by row; `--scene FILE ...` judges the scenes of files.
"""
