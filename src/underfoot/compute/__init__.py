"""From a case to its result: options become objects, contact and film are solved, friction read."""
