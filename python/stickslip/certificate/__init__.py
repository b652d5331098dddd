"""The certificate of a result: what the file alone tells of its claims (docs/certificate.md).

Nothing here is shared with the program: geometry and law of contact, ledger and momenta are written anew, from the equations in
docs/theory. No element and no material is evaluated, so that those of a new kind need nothing here.
"""
