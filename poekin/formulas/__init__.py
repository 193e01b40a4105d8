"""The mathematics, one algorithm a file: undecorated scalar code for any kind of scalar (see
`poekin.algebra`).
"""
