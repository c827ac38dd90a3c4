"""What a file of measurements holds: channels, plates, axes, conventions, calibration."""
