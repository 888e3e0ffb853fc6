export const phoneEn = {
  title: "Use this device as camera",
  lead: "Fix it so that nothing moves it, with the marker in view, and leave this page in front. Images go to the server; none is kept here.",
  preview: "What this device's camera sees",
  noPreview: "The picture of the camera appears here.",
  start: "START",
  stop: "STOP",
  state: {
    idle: "Not sending",
    connecting: "Connecting to the server …",
    opening: "Waiting for the camera …",
    sending: "Sending",
    lost: "No connection: tried again by itself",
    none: "Sending nothing",
  },
  image: "Image",
  imageValue: "{width} × {height} px · {size} · JPEG {quality} %",
  rate: "Sent",
  perSecond: "{rate} images/s",
  focus: "Focus",
  focusState: { locked: "locked", automatic: "automatic, NOT locked", unknown: "not known, NOT locked" },
  focusAt: "at {distance} m",
  times: "Image times",
  clock: {
    capture: "of the capture",
    presentation: "of the display: the capture was earlier, by an unknown time",
  },
  server: "Server",
  serverValue: "camera {state} · {rate} images/s",
  delay: "Arrives after",
  delayValue: "{min} to {max} ms",
  screenOff: "This browser does not keep the screen on: switch off its automatic lock in the settings.",
  noCamera: {
    insecure: {
      title: "This page was not opened over https",
      sentence:
        "Browsers hide the camera from such pages. Open the address that begins with https, or localhost on the computer of the server itself. A server that others reach speaks https by itself.",
    },
    denied: {
      title: "This page may not use the camera",
      sentence:
        "Allow the camera for this site in the browser's settings, reload this page, and touch START.",
    },
    none: {
      title: "This device has no camera that can be used",
      sentence: "Connect one, or use another device.",
    },
    busy: {
      title: "The camera is in use, or was taken away",
      sentence: "Close the other program that uses it, then touch START.",
    },
    old: {
      title: "This browser cannot send a camera",
      sentence: "It is too old. Use Chrome, Edge, Firefox or Safari of 2024 or later.",
    },
    other: {
      title: "The camera could not be opened",
      sentence: "Reload this page and touch START again.",
    },
  },
  limits: "What a phone's camera cannot do",
  limitList: {
    focus:
      "Not every device lets its focus be locked; iPhones and iPads do not. A focus that moves voids the calibration.",
    lens: "A phone with several lenses may change between them by itself, near or in the dark. Choose a distance at which it does not.",
    shutter:
      "Most phones read their sensor row by row, and do not say how fast: what moves is measured wrongly.",
    steady: "Image stabilisation shifts the picture. Switch it off where the device allows it.",
    other:
      "Another phone, or another lens, cannot be distinguished from the one that was calibrated: calibrate anew.",
    turn: "Turned from upright to lying, images have another size, and the calibration does not fit.",
  },
  dashboard: "To the dashboard",
};

export type PhoneTexts = typeof phoneEn;
