"""Pictures of what happened, from (scene, log) alone: movies, figures, and a player that travels.

Matplotlib lives here and nowhere else; it draws with Agg, without pyplot and without a display::

    frames     which times, and what is to be seen at each of them
    flights    free flights as a table                images     what is seen twice in a periodic domain
    window     what of a scene is seen
    outlines   the lines of walls and domain        palette, colouring   light, dark; what a colour says
    picture    one frame on a canvas                mp4, gif, strip      many of them in a file
    animate    a log to a file, by its suffix       figures/             one module a kind
    player/    an html page that plays a log by itself
"""

from importlib.util import find_spec

from eventsim.errors import EventsimError

if find_spec("matplotlib") is None:
    raise EventsimError("pictures need matplotlib: pip install 'eventsim-disks[figures]'")
