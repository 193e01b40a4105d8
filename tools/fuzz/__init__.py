"""Fuzzing of the readers: whatever a file holds, a robot or a PoekinError comes out of it, at once
and within 1 GiB.

`python -m tools.fuzz`, or `make fuzz`. Every input follows from seed, reader and number alone
(inputs.py).
"""
