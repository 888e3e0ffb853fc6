"""Dark regions: what is darker than its surroundings, and the four sides of its outline."""

from tracker.regions.dark import dark_mask, even_image, noise_grey, quads_of_mask

__all__ = ["dark_mask", "even_image", "noise_grey", "quads_of_mask"]
