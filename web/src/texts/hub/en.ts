export const hubEn = {
  title: "Theatres",
  nothingMoves: "This page controls nothing in any theatre.",
  all: "All theatres",
  presence: {
    live: "live",
    unmeasured: "delay not measured yet",
    unreadable: "not readable",
    stale: "stale",
    gone: "gone",
  },
  covered: {
    unmeasured: "How old its messages are is not known yet, so that nothing of it is shown.",
    unreadable:
      "This hub cannot read its state; it may have alarms. Run hub and theatre with the same version.",
    stale: "Its newest message is too old, so that nothing of it is shown.",
    gone: "It has sent nothing for more than ten seconds.",
  },
  lastHeard: "last heard at most",
  atMost: "at most",
  picture: "Picture",
  noPicture: "No recent picture",
  newestImage: "Age of the newest image",
  noImage: "no image",
  silent:
    "The hub does not answer. Nothing of any theatre is shown until it does. The theatres work without it.",
  seesNothing:
    "The account {name} sees no theatre. Who runs the hub adds it with its theatres under hub.sees in the settings.",
  noneHeard:
    "None of the theatres that this account sees ({names}) has been heard since the hub was started.",
  session: {
    title: "Acting in this theatre",
    signedIn: "Signed in at {theatre} as",
    leave: "Sign out there",
    needed:
      "To ask for a hold, to mark or to sign, sign in at {theatre} itself: its operator invites you as supervisor. The theatre " +
      "decides and logs what you do.",
    paste: "Invitation link of {theatre}",
  },
  through: "Through the hub: numbers are older here than in theatre. Their age is beside them.",
};

export type HubTexts = typeof hubEn;
