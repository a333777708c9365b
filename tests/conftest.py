"""What holds for all tests."""

from __future__ import annotations

import signal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # Whoever starts tests in the background makes them ignore interrupts, and all programs that they start to interrupt them.
    signal.signal(signal.SIGINT, signal.default_int_handler)
