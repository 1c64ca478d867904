"""Writes the scenes of this folder; standard library only."""
