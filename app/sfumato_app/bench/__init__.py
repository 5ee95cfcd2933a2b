"""The benchmark: how long a frame takes, ours and our peers', as ratios that hold on a busy machine too.

::

    phantom     the volume and its transfer function, made by code
    setting     what is drawn: volume, view, light, step
    ours, peer_vtk   the contenders: each draws one finished frame of a setting
    rows        the table's rows: who draws what
    measure     interleaved rounds
    ratios      what is divided by what, and the goals
    machine, report, plot   what is told about it

All contenders draw in one process and one thread, in turn: what slows the machine down for a while slows
all of them, and the median of each round's ratios is steadier than any time. On a software renderer, goals
are judged by the CPU time of all threads, else by wall time. To add a row, add a line to `rows.rows`; to
compare it, one to `ratios.RATIOS`.
"""

from .command import main

__all__ = ["main"]
