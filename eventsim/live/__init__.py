"""The live view: a server that simulates ahead of a page and streams events; the page flies the disks between them.

::

    menu        what the page's menu asks for, as a scene          source     which scene a page wants to see
    messages    what a page may say, checked                       packets    what it is told, as bytes
    track       one engine's run, piece by piece, that can go back
    world       a scene that is simulated for its viewers          viewer     one connection
    server      page, socket and downloads on the loopback         page/      html, css, plain JavaScript
"""
