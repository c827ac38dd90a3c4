"""The local web app: design a sole, see the answer, answer for safety; ``underfoot app`` serves it.

``serve`` holds the server, ``project`` the folder of plain files, ``jobs`` the two processes that
compute, ``work`` what they are asked, ``session`` what a page is given, ``pages`` the pages.
The server itself imports neither SciPy nor drawing libraries: it starts at once and stays small.
"""
