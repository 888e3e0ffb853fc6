export const tourEn = {
  title: "Tour",
  again: "Tour of three minutes through the rehearsal",
  count: "{at} of {all}",
  escape: "Esc leaves",
  back: "Back",
  next: "Next",
  end: "End of the tour",
  leave: "Leave",
  offer: {
    title: "New here?",
    sentence:
      "A tour of three minutes shows what each page is for. It changes nothing, and you can leave it at any time.",
    start: "Start the tour",
    later: "Not now",
  },
  stations: {
    video: {
      title: "The video",
      sentence:
        "The camera sees the square marker on the drill. The planned channel is drawn into the video in blue, the drill's line in orange. When the video is late or missing, it is covered, with the reason.",
    },
    alarms: {
      title: "The alarms",
      sentence:
        "This band shows the most urgent alarm by name, colour and number of marks, in theatre also by sound. On these pages it stays in view, and nothing covers it.",
    },
    steps: {
      title: "The steps",
      sentence:
        "A procedure goes from top to bottom: ✓ is done, ○ to do. An exclamation mark is out of date: a new plan, for example, ends the registration that was made with the old one.",
    },
    camera: {
      title: "Camera",
      sentence:
        "Move a printed board in front of the camera: views are captured automatically. The error in pixels and its limit decide whether the calibration is stored.",
    },
    tool: {
      title: "Tool",
      sentence:
        "Tilt the drill about its resting tip, then spin it: this gives tip and axis relative to the marker. A certificate states how accurate camera and tool are together.",
    },
    plan: {
      title: "Plan",
      sentence:
        "On the CT: the vertebra, a channel and a screw for each side, and the landmarks that are touched later. The rehearsal has a CT of its own.",
    },
    register: {
      title: "Registration",
      sentence:
        "It brings plan and patient together, for example by touching landmarks with the tip. The expected error at the entry point is stated, and rejected above its limit.",
    },
    check: {
      title: "Check",
      sentence:
        "Touch a landmark that was not used for the registration. No figures are shown before a check has passed, and it is due again after some time.",
    },
    figures: {
      title: "Four figures with their limits",
      sentence:
        "Entry, angle, depth and wall: white is within the limit, yellow over it, red through the wall or past the end. When a figure would be old or unreliable, its reason is shown instead.",
    },
    theatre: {
      title: "The theatre's screen",
      sentence:
        "The same video and figures, readable from 3 m, with the CT under the drill. A touch or a foot switch changes the layout. Sound must be armed once by a touch.",
    },
    supervisor: {
      title: "The supervisor's page",
      sentence:
        "A second clinician sees the same from anywhere, points and draws on the video, co-signs, and asks to hold. This page changes nothing of the procedure.",
    },
    report: {
      title: "The report",
      sentence:
        "All steps with numbers, limits and names, to print. To try a step yourself, play its scene under Rehearsal on the page Case; ? on each page opens the guide.",
    },
  },
};

export type TourTexts = typeof tourEn;
