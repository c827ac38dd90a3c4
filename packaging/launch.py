"""Where the bundled program begins: the commands of `underfoot`, the app where none is given."""

import multiprocessing
import sys

if __name__ == "__main__":
    multiprocessing.freeze_support()  # a worker of a bundle is this program once more
    if len(sys.argv) == 1:
        sys.argv.append("app")
    from underfoot.cli import main

    main()
