// The session of this page. Scripts cannot read the cookie; the server states whose it is.
import {
  createContext,
  use,
  useCallback,
  useEffect,
  useEffectEvent,
  useRef,
  useState,
  type ReactNode,
} from "react";
import { deleteSession, getSession } from "../api";
import { OWN_SERVER } from "../hub/openedTheatre";
import { onSessionGone, Rejection } from "../rest/client";
import { sessionAfter, type Session } from "./sessionAfter";

export type { Role, Session, Who } from "./sessionAfter";

interface SessionValue {
  session: Session;
  /** Asks the server again whose session this is. */
  refetch: () => void;
  /** Signs out. The server ends every picture and socket of the session. */
  leave: () => Promise<void>;
}

/** A closed socket carries no reason: the page asks, so that no view outlives its session. */
const ASK_EVERY_MS = 3000;

const SessionContext = createContext<SessionValue | null>(null);

/** The user, or the code of the reason why there is none. */
async function ask(): Promise<Session | string> {
  try {
    const { name, role, sign_in_required, is_hub } = await getSession(OWN_SERVER);
    return { state: "in", who: { name, role }, required: sign_in_required, isHub: is_hub };
  } catch (error) {
    if (error instanceof Rejection) return error.problem.code;
    throw error;
  }
}

export function SessionProvider({ children }: { children: ReactNode }): ReactNode {
  const [session, setSession] = useState<Session>({ state: "asking", silent: false });
  const asking = useRef(false);
  // With a link in the address nobody is signed in yet; the sign-in page uses the link and then asks.
  const [byLink] = useState(() => location.pathname === "/enter" && location.hash.length > 1);

  const refetch = useCallback(() => {
    if (asking.current) return;
    asking.current = true;
    void ask()
      .then((answer) => {
        setSession((before) => sessionAfter(before, answer));
      })
      .finally(() => {
        asking.current = false;
      });
  }, []);

  const leave = useCallback(async () => {
    await deleteSession(OWN_SERVER);
    setSession({ state: "out", expired: false });
  }, []);

  const onTick = useEffectEvent(() => {
    // After sign-out, return is by a link or another tab; each further question would count as an attempt.
    if (session.state !== "out") refetch();
  });
  const onGone = useEffectEvent(() => {
    if (session.state === "in") refetch();
  });
  useEffect(() => {
    const stop = new AbortController();
    if (!byLink) refetch();
    const timer = setInterval(onTick, ASK_EVERY_MS);
    const endGone = onSessionGone(onGone);
    addEventListener("focus", refetch, { signal: stop.signal });
    return () => {
      stop.abort();
      endGone();
      clearInterval(timer);
    };
  }, [refetch, byLink]);

  return <SessionContext value={{ session, refetch, leave }}>{children}</SessionContext>;
}

export function useSession(): SessionValue {
  const value = use(SessionContext);
  if (value === null) throw new Error("useSession must be used inside SessionProvider");
  return value;
}
