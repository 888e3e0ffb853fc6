export const navigateEn = {
  title: "Navigation",
  open: "All steps are valid.",
  checked: "Check on {landmark} passed: {mm} mm, allowed {max} mm.",
  recheck: "Check again",
  shutTitle: "No navigation yet",
  dueTitle: "Due again; navigation continues",
  goTo: "Open:",
  cameraMoved: {
    title: "The camera was moved",
    remedy: "Plan and patient no longer agree. Fix the camera in its present position, then register again.",
    go: "Register again",
  },
  referenceMoved: {
    title: "The patient or the patient marker was moved",
    remedy:
      "If the marker is still fixed to the bone, a check on a landmark shows whether everything agrees. Otherwise register again.",
    go: "Check on a landmark",
  },
  tip: "Tip",
  lag: "Smoothing",
  steadied: "smoothed, delayed by",
  notSteadied: "none, each image by itself",
  markers: "Markers last seen",
  neverSeen: "never",
  noChannel: "No channel chosen",
  switchTo: "Another channel …",
  sameVertebra: "Same vertebra: registration and check remain valid.",
  otherVertebra:
    "Another vertebra: {vertebra} needs its own registration and check. No numbers are shown until then.",
  switchSure: "Yes, drill {channel}",
};

export type NavigateTexts = typeof navigateEn;
