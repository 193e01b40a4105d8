"""How chains and robots show themselves: a figure for print, tables for a notebook."""
