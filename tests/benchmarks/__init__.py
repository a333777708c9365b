"""Rates of the engines; not part of the test run."""
