"""Published studies run again: those of the report, how far they fix its parameters, the corpus.

Each module has ``STATEMENTS``, the file of what is printed, and ``compute``; the package
``underfoot`` finds them by entry point, judges and prints them (``underfoot studies``).
"""
