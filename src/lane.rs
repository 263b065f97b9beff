//! Lanes: the arithmetic of 8 neighbouring cells at once, one lane a cell.
