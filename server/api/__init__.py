"""REST and WebSocket API: routers, messages and error responses."""
