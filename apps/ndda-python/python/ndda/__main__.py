"""`python -m ndda`: the command `ndda`."""

import sys

from ndda._command import main

sys.exit(main())
