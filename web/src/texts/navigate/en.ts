export const navigateEn = {
  title: "Navigation",
  open: "All steps hold.",
  checked: "The check on {landmark} passed: {mm} mm, allowed {max} mm.",
  recheck: "Check again",
  shutTitle: "No navigation yet",
  dueTitle: "Due again; navigation goes on",
  goTo: "To",
  cameraMoved: {
    title: "The camera was moved",
    remedy: "Plan and patient do not fit any more. Fix the camera where it stands now, then register again.",
    go: "Register again",
  },
  referenceMoved: {
    title: "The patient, or the marker on the patient, was moved",
    remedy:
      "If the marker is still firm on the bone, a check on a landmark tells whether all fits. Otherwise register again.",
    go: "Check on a landmark",
  },
  tip: "Tip",
  lag: "Steadiness",
  steadied: "steadied, behind by",
  notSteadied: "each image for itself",
  markers: "Last sight of the markers",
  neverSeen: "never",
  noChannel: "No channel is chosen",
  switchTo: "Another channel …",
  sameVertebra: "Same vertebra: registration and check go on to hold.",
  otherVertebra:
    "Another vertebra: {vertebra} needs a registration and a check of its own. Numbers stop until then.",
  switchSure: "Yes, drill {channel}",
};

export type NavigateTexts = typeof navigateEn;
