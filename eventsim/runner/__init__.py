"""HOW A RUN IS CONDUCTED, whichever engine does it: its loop, the writing of its rows, its checkpoints, its residuals."""
