"""All cases of docs/validation.md, in the order of the page."""

import impacts
import waves

CASES = waves.CASES + impacts.CASES
