// Nudges by hand, in the patient's directions.
export const nudgesEn = {
  nudges: {
    needsRegistration: "There is no registration to nudge. Register first.",
    checkAgain: "Each nudge creates a new registration: check it on a landmark before navigation.",
    kind: "Shift or rotate",
    shift: "Shift",
    turn: "Rotate",
    step: "Step size",
    pad: "Nudge the drawn vertebra",
    shiftTo: {
      left: { minus: "to the right", plus: "to the left" },
      back: { minus: "to the front", plus: "to the back" },
      head: { minus: "to the feet", plus: "to the head" },
    },
    turnTo: {
      left: { minus: "back side to the feet", plus: "back side to the head" },
      back: { minus: "upper end to the right", plus: "upper end to the left" },
      head: { minus: "left side to the front", plus: "left side to the back" },
    },
    sumMm: "Total shift",
    sumDeg: "Total rotation",
    allowed: "allowed",
    undo: "Undo the last nudge",
    log: "Valid nudges",
    logEmpty: "No nudges so far.",
  },
};

export type NudgesTexts = typeof nudgesEn;
