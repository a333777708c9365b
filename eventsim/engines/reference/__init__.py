"""The reference engine: plain Python that reads like the textbook; the oracle of the others."""
