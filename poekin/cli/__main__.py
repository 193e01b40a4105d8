"""`python -m poekin.cli` is the command `poekin`."""

from . import main

main()
