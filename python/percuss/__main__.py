"""`python -m percuss` is the command `percuss`."""

import sys

from percuss._command import main

sys.exit(main())
