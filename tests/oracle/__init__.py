"""Masses, energies, momenta, stresses and forces of the elements of a result, computed anew in Python: an oracle of the tests.

Nothing here is shared with the program: elements and materials are written anew, from the equations in docs/theory. What
the oracle does not know, as the law of a new material, it does not tell. docs/certificate.md says what it checks.
"""
