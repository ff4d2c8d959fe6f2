"""The command `arl2rs`."""

import sys

from ._arl2rs import command


def main() -> int:
    """Executes the command line."""
    return command(["arl2rs", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
