// Nudges by hand, in the patient's directions.
export const nudgesEn = {
  nudges: {
    needsRegistration: "There is no registration to nudge. Register first.",
    checkAgain: "Each nudge makes another registration: check it on a landmark before navigating.",
    kind: "Shift or turn",
    shift: "Shift",
    turn: "Turn",
    step: "Size of a step",
    pad: "Nudge the drawn vertebra",
    shiftTo: {
      left: { minus: "to the right", plus: "to the left" },
      back: { minus: "to the front", plus: "to the back" },
      head: { minus: "to the feet", plus: "to the head" },
    },
    turnTo: {
      left: { minus: "back side feetwards", plus: "back side headwards" },
      back: { minus: "upper end to the right", plus: "upper end to the left" },
      head: { minus: "left side forwards", plus: "left side backwards" },
    },
    sumMm: "Shifted in all",
    sumDeg: "Turned in all",
    allowed: "allowed",
    undo: "Undo the last nudge",
    log: "Nudges that hold",
    logEmpty: "Nothing has been nudged.",
  },
};

export type NudgesTexts = typeof nudgesEn;
