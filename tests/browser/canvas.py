"""What stands on a canvas of the page."""

# A canvas that shows bitmaps has no context to read from: its pixels (RGBA) are those of a copy.
PIXELS = """(canvas => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    return copy.getImageData(0, 0, canvas.width, canvas.height).data;
})"""
