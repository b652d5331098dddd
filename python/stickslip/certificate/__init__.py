"""The certificate of a result: its claims recomputed from the file alone (docs/certificate.md).

Nothing here is shared with the program: elements, materials, geometry of contact and ledger are
written anew, from the equations of docs/theory.md.
"""
