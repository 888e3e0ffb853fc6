// The session state after each answer of the server.

export type Role = "operator" | "supervisor" | "viewer" | "screen" | "camera";

export interface Who {
  name: string;
  role: Role;
}

export type Session =
  /** `silent` if the server has not answered. */
  | { state: "asking"; silent: boolean }
  /** `isHub` if this server is the hub of many theatres. */
  | { state: "in"; who: Who; required: boolean; isHub: boolean }
  /** Nobody is signed in; `expired` if somebody was. */
  | { state: "out"; expired: boolean };

/** Returns the next state from an answer, or from the code of a rejection. */
export function sessionAfter(before: Session, answer: Session | string): Session {
  if (typeof answer !== "string") return same(before, answer) ? before : answer;
  if (answer === "SESSION_NEEDED" || answer === "SESSION_EXPIRED") {
    const was = before.state === "in" || (before.state === "out" && before.expired);
    const expired = was || answer === "SESSION_EXPIRED";
    return before.state === "out" && before.expired === expired ? before : { state: "out", expired };
  }
  // A lost server does not end a session; the panes show that it is lost.
  return before.state === "asking" ? { state: "asking", silent: true } : before;
}

function same(one: Session, other: Session): boolean {
  return (
    one.state === "in" &&
    other.state === "in" &&
    one.who.name === other.who.name &&
    one.who.role === other.who.role &&
    one.required === other.required &&
    one.isHub === other.isHub
  );
}
