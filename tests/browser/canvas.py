"""Reads the pixels of a canvas of the page."""

# A bitmap canvas has no readable context, so its pixels (RGBA) are read from a copy.
PIXELS = """(canvas => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    return copy.getImageData(0, 0, canvas.width, canvas.height).data;
})"""
