"""What an image shows inside an outline, cell by cell, and the same in even light. Only compiled loops."""
