"""Text read and written safely: XML, YAML, TOML, CSV, numbers, whole files."""
