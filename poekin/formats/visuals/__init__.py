"""What a robot looks like, as data: shapes that hang on its links, and names of mesh files."""
