"""``python -m underfoot``, where the command ``underfoot`` is not on the path."""

from .cli import main

if __name__ == "__main__":
    main()
