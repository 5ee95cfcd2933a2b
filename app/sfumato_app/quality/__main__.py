"""``python -m sfumato_app.quality``."""

import sys

from . import main

sys.exit(main(sys.argv[1:]))
