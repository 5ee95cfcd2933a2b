"""``sfumato`` and ``python -m sfumato_app``: from arguments to an exit status.

0: done. 1: bad input or device, told in one line on stderr. 2: wrong usage. 130: Ctrl+C.
``--debug`` shows tracebacks, and the warnings of libraries.
"""

from __future__ import annotations

import os
import sys
import traceback
import warnings
from collections.abc import Sequence

DONE, FAILED, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit status."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in given
    with warnings.catch_warnings():
        if not (debug or sys.warnoptions):
            warnings.simplefilter("ignore")
        return _run([a for a in given if a != "--debug"], debug)


def _run(arguments: list[str], debug: bool) -> int:
    from cyclopts import CycloptsError

    from sfumato import SfumatoError

    from .cli import app
    from .errors import UsageError

    try:
        status = app(arguments, exit_on_error=False, print_error=False)
        sys.stdout.flush()
        return status if isinstance(status, int) else DONE
    except (CycloptsError, UsageError) as error:
        return _tell(error, WRONG_USAGE, debug)
    except SfumatoError as error:
        return _tell(error, FAILED, debug)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader (head, less) went away: nothing is wrong. Python would complain on its last flush.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except Exception as error:
        return _tell(
            f"{type(error).__name__}: {error} (a fault of Sfumato; --debug shows where)", FAILED, debug
        )


def _tell(error: object, status: int, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    print("sfumato: error: " + " ".join(str(error).split()), file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
