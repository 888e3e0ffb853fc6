export const latencyEn = {
  title: "Latency",
  lead: "How old the picture is that a hand goes by: from the light before the camera to this page. Codes fill this screen for some 20 seconds while the camera looks at it; it measures what this camera and this screen do together.",
  never: "Not measured yet with this camera.",
  begin: "Measure",
  beginAgain: "Measure again",
  aim: "Point the camera at this screen until the code fills a good part of its picture.",
  measuring: "Measuring: hold the camera still.",
  read: "Read in {read} of {looked} images.",
  stop: "Stop",
  codeAlt: "A code that changes about eight times a second",
  perSecond: "images/s",
  median: "Light to page, median",
  p99: "Light to page, 99 % within",
  stage: {
    "screen and camera": "Screen and camera",
    tracking: "Tracking",
    server: "Server",
    line: "Line",
    page: "Page",
  },
  resolution:
    "{samples} codes in {images} images, {skipped} skipped. One image comes every {period} ms: a code that appears between two images is seen {late} ms late on average, which is in these numbers, as is the screen's own delay, once. The screen shows an image every {screen} ms. The clocks of page and server agree within {clocks} ms; that moves time between the stages alone.",
  lightToPage: "Light to page",
  measured: "{median} ms median, {p99} ms p99, measured {day}",
  notMeasured: "not measured",
  otherImages: "measured with {size} at {rate} images/s, other than now: measure again",
};

export type LatencyTexts = typeof latencyEn;
