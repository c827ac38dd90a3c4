"""Files of other programs: recordings read, soles with fields written; a wing beside the core."""
