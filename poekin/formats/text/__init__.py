"""Text read and written safely: XML, YAML, TOML, CSV, numbers; files that appear whole or not at
all.
"""
