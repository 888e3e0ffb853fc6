export const latencyEn = {
  title: "Latency",
  lead: "Time from the light in front of the camera to the display on this page. This screen shows codes for about 20 seconds, which the camera records. The result applies to this camera with this screen.",
  never: "Not measured with this camera yet.",
  simulated: "The camera is simulated and sees no screen: only the latency of a real camera is measured.",
  begin: "Measure",
  beginAgain: "Measure again",
  aim: "Point the camera at this screen until the code fills a good part of its picture.",
  measuring: "Measuring: hold the camera still.",
  read: "Code read in {read} of {looked} images.",
  stop: "Stop",
  codeAlt: "A code that changes about eight times a second",
  perSecond: "images/s",
  median: "Light to page, median",
  p99: "Light to page, 99 % within",
  stage: {
    "screen and camera": "Screen and camera",
    tracking: "Tracking",
    server: "Server",
    line: "Connection",
    page: "Page",
  },
  resolution:
    "Codes: {samples}, images: {images}, skipped: {skipped}. The camera sends an image every {period} ms, so a code is recorded {late} ms after it appears, on average. The values include this time and the delay of the screen. The screen shows an image every {screen} ms. The clocks of page and server agree within {clocks} ms; this affects only the division into stages.",
  lightToPage: "Light to page",
  measured: "{median} ms median, {p99} ms p99, measured {day}",
  notMeasured: "not measured",
  otherImages: "measured with {size} at {rate} images/s, the setting is now different: measure again",
};

export type LatencyTexts = typeof latencyEn;
