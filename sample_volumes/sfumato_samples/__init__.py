"""Sample volumes made by code."""
