export const phoneEn = {
  title: "Use this device as camera",
  lead: "Fix the device so that it cannot move, with the marker in view, and keep this page open. The images are sent to the server and not stored here.",
  preview: "Picture of this device's camera",
  noPreview: "The picture of the camera appears here.",
  start: "START",
  stop: "STOP",
  state: {
    idle: "Not sending",
    connecting: "Connecting to the server …",
    opening: "Waiting for the camera …",
    sending: "Sending",
    lost: "No connection: retrying automatically",
    none: "Sending nothing",
  },
  image: "Image",
  imageValue: "{width} × {height} px · {size} · JPEG {quality} %",
  rate: "Sent",
  perSecond: "{rate} images/s",
  focus: "Focus",
  focusState: { locked: "locked", automatic: "automatic, NOT locked", unknown: "unknown, NOT locked" },
  focusAt: "at {distance} m",
  times: "Image times",
  clock: {
    capture: "of the capture",
    presentation: "of the display; the capture was earlier, by an unknown time",
  },
  server: "Server",
  serverValue: "camera {state} · {rate} images/s",
  delay: "Transfer time",
  delayValue: "{min} to {max} ms",
  screenOff: "This browser cannot keep the screen on: switch off the automatic lock.",
  noCamera: {
    insecure: {
      title: "This page was not opened over https",
      sentence:
        "Browsers allow the camera only over https. Open the address that begins with https, or localhost on the server's computer. A server that others can reach uses https automatically.",
    },
    denied: {
      title: "This page may not use the camera",
      sentence:
        "Allow the camera for this site in the browser's settings, reload this page, and touch START.",
    },
    none: {
      title: "This device has no usable camera",
      sentence: "Connect one, or use another device.",
    },
    busy: {
      title: "The camera is in use or was disconnected",
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
  limits: "Limitations of phone cameras",
  limitList: {
    focus:
      "The focus cannot be locked on every device, and never on iPhones and iPads. If the focus changes, the calibration is invalid.",
    lens: "Phones with several lenses may switch between them automatically, at close range or in low light. Choose a distance at which this does not happen.",
    shutter:
      "Most phones read the sensor row by row and do not state the readout time: moving objects are measured wrongly.",
    steady: "Image stabilisation shifts the picture. Switch it off where the device allows it.",
    other: "Another phone or lens is not recognised: calibrate again after a change.",
    turn: "The image size differs between portrait and landscape: the calibration is then not valid.",
  },
  dashboard: "To the dashboard",
};

export type PhoneTexts = typeof phoneEn;
