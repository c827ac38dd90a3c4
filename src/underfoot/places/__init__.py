"""Slip test machines as devices of the model, and which shoe suits a place."""
