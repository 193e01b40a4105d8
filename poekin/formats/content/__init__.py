"""Content of models before its format is known: out of pipes and archives, and its kind."""
