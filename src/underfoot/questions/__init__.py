"""Questions answered by running a case several times."""
