"""How the database of an older version becomes that of this one: a file in `versions` for each change."""
