"""Template matching of quadrilaterals: coarse match, template match, and least-squares refinement.

Templates are locally normalised: each cell is compared with the cells around it, so a shadow or a highlight
does not change the correlation of the rest. All models share one set of quads and one sampling. A marker
therefore needs white paper around its square.

The best quads are aligned by least squares (Lucas-Kanade) with a template, blurred by defocus or motion.
Under motion blur or with an occluded corner a true quad has an error of a tenth of its side, and without
alignment a plain dark square correlates better; after alignment, the true quad ranks first in nine of ten
images. It takes 50 us per quad.
"""

from tracker.marker.template_matching.match import STEPS, coarse_match, refine_quads, template_match
from tracker.marker.template_matching.templates import Template, Templates, templates_of

__all__ = ["STEPS", "Template", "Templates", "coarse_match", "refine_quads", "template_match", "templates_of"]
