// Signs in with a link, once per link regardless of re-rendering.
import { useEffect, useEffectEvent, useRef, useState } from "react";
import { useLocation } from "wouter";
import { useSession } from "../app/session";
import { homeOf } from "../app/views";
import { postSession } from "../api";
import { OWN_SERVER } from "../hub/openedTheatre";
import { Rejection } from "../rest/client";
import { takeToken } from "./token";

interface SignIn {
  busy: boolean;
  rejection: Rejection | null;
  signIn: (token: string) => void;
}

/** Reads a link from the address at once; `enter` takes a typed one. */
export function useSignIn(): SignIn {
  const { refetch } = useSession();
  const [, go] = useLocation();
  const [busy, setBusy] = useState(false);
  const [rejection, setRejection] = useState<Rejection | null>(null);
  const trying = useRef(false);

  const signIn = (token: string): void => {
    if (trying.current) return;
    trying.current = true;
    setBusy(true);
    setRejection(null);
    postSession({ ...OWN_SERVER, body: { invitation: token } })
      .then(({ role, is_hub }) => {
        refetch();
        go(is_hub ? "/" : homeOf(role), { replace: true });
      })
      .catch((error: unknown) => {
        refetch();
        if (!(error instanceof Rejection)) throw error;
        setRejection(error);
      })
      .finally(() => {
        trying.current = false;
        setBusy(false);
      });
  };

  const onLink = useEffectEvent(() => {
    const token = takeToken();
    if (token !== null) signIn(token);
  });
  useEffect(() => {
    const stop = new AbortController();
    onLink();
    addEventListener("hashchange", onLink, { signal: stop.signal });
    return () => {
      stop.abort();
    };
  }, []);
  return { busy, rejection, signIn };
}
