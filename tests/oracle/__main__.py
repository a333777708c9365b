"""python -m tests.oracle."""

import sys

from tests.oracle.command import main

sys.exit(main())
