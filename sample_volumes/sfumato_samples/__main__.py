"""``python -m sfumato_samples``: make every sample, tell its time; with ``--write``, renew checksums.json."""

from __future__ import annotations

import json
import sys
import time

from .cache import checksum
from .catalogue import CHECKSUMS, ENTRIES


def main() -> int:
    """Make all samples; return 1 if one differs from the catalogue."""
    known = json.loads(CHECKSUMS.read_text(encoding="utf-8")) if CHECKSUMS.exists() else {}
    made = {}
    for item in ENTRIES.values():
        start = time.perf_counter()
        data = item.generate()
        seconds = time.perf_counter() - start
        made[item.name] = checksum(data)
        state = (
            "as in the catalogue" if made[item.name] == known.get(item.name) else "differs from the catalogue"
        )
        print(
            f"{item.name:14} {seconds:5.2f} s  {data.shape} {data.dtype} {data.min()} .. {data.max()}",
            state,
        )
    if "--write" in sys.argv[1:]:
        CHECKSUMS.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
        return 0
    return 0 if made == known else 1


if __name__ == "__main__":
    sys.exit(main())
