export const signInEn = {
  about: {
    title: "What is Coaxial?",
    drawing:
      "A camera sees the marker on a drill, whose tip is in a vertebra. A screen shows the drill beside the planned channel.",
    sentences: [
      "Coaxial helps a surgeon to drill along a planned channel in a vertebra.",
      "A camera sees a printed square on the drill, from which Coaxial computes where tip and axis are.",
      "The screen shows them beside the plan: in the live video, in numbers and in the CT.",
    ],
    camera: "camera",
    marker: "marker",
    drill: "drill",
    channel: "planned channel",
    screen: "screen",
  },
  help: {
    title: "Where is my link?",
    started: {
      who: "You started the server",
      how: "The terminal in which it runs printed the operator's link:",
    },
    invited: {
      who: "You were invited",
      how: "Open the link from the operator, or scan its code with this device.",
    },
    lost: {
      who: "The link is lost or used",
      how: "Ask the operator for a new invitation. If there is no operator, stop the server, which interrupts navigation, and start it with one of these:",
    },
    guide: "User guide",
  },
  needed: {
    title: "Sign in",
    sentence: "Open the link that you were given. It signs this device in.",
  },
  expired: {
    title: "Your session has ended",
    sentence:
      "It expired, or the operator ended it. Nothing live is shown any more. Ask the operator for a new invitation.",
  },
  silent: {
    title: "The server does not answer",
    sentence:
      "Retrying automatically. Check that this device is on the right network, and that Coaxial is running.",
  },
  rejected: {
    INVITATION_UNKNOWN: {
      title: "This link does not belong to this server",
      sentence:
        "Check that it was copied completely and is for this server. Otherwise ask the operator for a new link.",
    },
    INVITATION_USED: {
      title: "This link has already been used",
      sentence:
        "It was valid for one sign-in. If that was not you, tell the operator at once and ask for a new link.",
    },
    INVITATION_EXPIRED: {
      title: "This link has expired",
      sentence: "Ask the operator for a new one.",
    },
    INVITATION_REVOKED: {
      title: "This link was withdrawn",
      sentence: "Ask the operator for a new one.",
    },
    INVITATION_FULL: {
      title: "Too many devices are signed in with this link",
      sentence: "Sign out on a device that is not needed, or ask the operator for a separate link.",
    },
    TOO_MANY_TRIES: {
      title: "Too many attempts with wrong links",
      sentence: "Wait a moment, then open the link again.",
    },
    NO_ANSWER: {
      title: "The server does not answer",
      sentence: "Check that this device is on the right network, then open the link again.",
    },
  },
  entering: "Signing in …",
  asking: "One moment …",
  paste: "Or paste the link here",
  pasteHint: "The whole link, or the part after its #.",
  noLink: "This is not a complete invitation link.",
  signIn: "Sign in",
  signedInAs: "Signed in as",
  goOn: "Continue",
  role: {
    operator: "Operator",
    supervisor: "Supervisor",
    viewer: "Viewer",
    screen: "Theatre screen",
    camera: "Camera",
  },
  leaveTitle: "Sign out?",
  leaveSentence: "This device then shows nothing any more. You need a new invitation to sign in again.",
  onlyTitle: "You are the only operator",
  onlySentence:
    "Nobody will be able to set up, register or confirm. A new operator link is printed only when the server is restarted, which interrupts navigation.",
  onlyInvite: "Invite another operator first",
  leaveAnyway: "Sign out anyway",
  leave: "Sign out",
  stay: "Stay signed in",
};

export type SignInTexts = typeof signInEn;
