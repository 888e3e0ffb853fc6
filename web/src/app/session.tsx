// Who is signed in here. The cookie itself is out of reach for scripts; the server says whose it is.
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
import { answered, onSessionGone, Rejection, server } from "../rest/client";
import { sessionAfter, type Session } from "./sessionAfter";

export type { Role, Session, Who } from "./sessionAfter";

interface SessionValue {
  session: Session;
  /** Ask the server again who this is. */
  refetch: () => void;
  /** Sign out; every picture and socket of this session ends. */
  leave: () => Promise<void>;
}

/** Sockets that the server closes say no reason to a page: it asks, so that no view outlives its session. */
const ASK_EVERY_MS = 3000;

const SessionContext = createContext<SessionValue | null>(null);

/** Who this is, or the code of why nobody is. */
async function ask(): Promise<Session | string> {
  try {
    const { name, role, sign_in_required } = await answered(server.GET("/api/session"));
    return { state: "in", who: { name, role }, required: sign_in_required };
  } catch (error) {
    if (error instanceof Rejection) return error.problem.code;
    throw error;
  }
}

export function SessionProvider({ children }: { children: ReactNode }): ReactNode {
  const [session, setSession] = useState<Session>({ state: "asking", silent: false });
  const asking = useRef(false);
  // Who comes by a link is nobody yet: whoever takes the link asks.
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
    await answered(server.DELETE("/api/session"));
    setSession({ state: "out", expired: false });
  }, []);

  const onTick = useEffectEvent(() => {
    // Who is out comes back by a link, or by having signed in beside; each question would count as a try.
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
