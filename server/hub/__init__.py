"""Publication of a theatre through a NATS server of the hospital, and what the hub makes of it.

A theatre never needs the hub: publishing runs in a process of low priority (`server.sinks`), from which
nothing comes back. Live subjects are core NATS, newest wins, and nothing is stored; what must not be lost
goes through the outbox, a file of the theatre, into JetStream.

subjects.py    names of subjects, streams and buckets
envelope.py    header of each live message: age at sending, and echoes of the hub's clock
delays.py      upper bound of a message's age by the hub's own clock
outbox.py      entries on the theatre's disk until JetStream has stored them
claim.py       lease on the name of a theatre
connection.py  connection to the NATS server
publisher.py   the theatre's process
theatre.py     what the web process gives to it
watcher.py     the hub: newest message of each theatre, and how old it is at most
theatres.py    list of all theatres
pictures.py    picture with the live message of its image
relay.py       live message as the hub sends it to pages
requests.py    requests of supervisors, and how the theatre answers them
requester.py   the hub's side of them
opened.py      theatres that somebody at the hub has opened
"""
