"""The changes of the database, in the order that `down_revision` tells; none is ever edited again."""
