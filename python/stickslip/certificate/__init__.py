"""The certificate of a result: checks of the claims of a result, from its file alone (docs/certificate.md).

The package shares no code with the program: it computes geometry and law of contact, ledger and momenta itself, from
the equations in docs/theory. No element and no material is evaluated, so a new kind of element or material needs no
change here.
"""
