export const signInEn = {
  needed: {
    title: "Sign in",
    sentence:
      "Open the link of your invitation, or scan its code. The operator's first link is shown in the window in which the server was started.",
  },
  expired: {
    title: "Your session is over",
    sentence:
      "Its time has run out, or the operator has ended it. Nothing live is shown any more. Ask the operator for a new invitation.",
  },
  silent: {
    title: "The server does not answer",
    sentence:
      "It is tried again by itself. Check that this device is in the right network, and that Coaxial is running.",
  },
  rejected: {
    INVITATION_UNKNOWN: {
      title: "This link does not open this server",
      sentence:
        "Check that it was copied whole, and is for this server. Otherwise ask the operator for a new one.",
    },
    INVITATION_USED: {
      title: "This link has been used",
      sentence:
        "It was for one sign-in. If that was not you, tell the operator at once; then ask for a new link.",
    },
    INVITATION_EXPIRED: {
      title: "The time of this link is over",
      sentence: "Ask the operator for a new one.",
    },
    INVITATION_REVOKED: {
      title: "This link was taken back",
      sentence: "Ask the operator for a new one.",
    },
    INVITATION_FULL: {
      title: "Too many are signed in by this link",
      sentence: "Sign out on a device that does not need it, or ask the operator for a link of your own.",
    },
    TOO_MANY_TRIES: {
      title: "Too many wrong links were tried",
      sentence: "Wait a little, then open the link once more.",
    },
    NO_ANSWER: {
      title: "The server does not answer",
      sentence: "Check that this device is in the right network, then open the link once more.",
    },
  },
  entering: "Signing in …",
  asking: "One moment …",
  paste: "Or paste the link here",
  pasteHint: "The whole link, or the part after its #.",
  noLink: "This is no whole link of an invitation.",
  signIn: "Sign in",
  signedInAs: "Signed in as",
  goOn: "Go on",
  role: {
    operator: "Operator",
    supervisor: "Supervisor",
    viewer: "Viewer",
    screen: "Theatre screen",
    camera: "Camera",
  },
  leaveTitle: "Sign out?",
  leaveSentence: "This device shows nothing more after that. To come back you need a new invitation.",
  onlyTitle: "You are the only operator",
  onlySentence:
    "Nobody else can set up, register or confirm after that. A new link for an operator is printed only when the server is stopped and started again, and navigation is interrupted meanwhile.",
  onlyInvite: "Invite another operator first",
  leaveAnyway: "Sign out all the same",
  leave: "Sign out",
  stay: "Stay",
};

export type SignInTexts = typeof signInEn;
