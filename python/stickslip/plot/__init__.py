"""Pictures of results with matplotlib: motion, histories, fields along a line."""
