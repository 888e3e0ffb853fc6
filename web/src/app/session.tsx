// Who is signed in here. The cookie itself is out of reach for scripts; the server says whose it is.
import { createContext, use, useState, type ReactNode } from "react";

export type Role = "operator" | "supervisor" | "viewer" | "screen";

export interface Who {
  name: string;
  role: Role;
}

export type Session =
  | { state: "asking" }
  | { state: "in"; who: Who; required: boolean }
  /** Nobody is signed in; `expired` where somebody was. */
  | { state: "out"; expired: boolean };

interface SessionValue {
  session: Session;
  /** Ask the server again who this is. */
  again: () => void;
}

const SessionContext = createContext<SessionValue | null>(null);

export function SessionProvider({ children }: { children: ReactNode }): ReactNode {
  // The server's sessions come with `/api/session`; until then everybody is the operator.
  const [session] = useState<Session>({ state: "in", who: { name: "", role: "operator" }, required: false });
  const again = (): void => undefined;
  return <SessionContext value={{ session, again }}>{children}</SessionContext>;
}

export function useSession(): SessionValue {
  const value = use(SessionContext);
  if (value === null) throw new Error("useSession stands outside SessionProvider");
  return value;
}
