"""A laboratory of combinations: small decks of every pair of levels, judged without stored answers."""
