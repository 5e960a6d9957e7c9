// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// AXI4-Lite port of a register bank, 32 bits. Write address and write data come in either order, one write and one
// read at a time. The bank answers in the same cycle.
//
// Address and data are registered on the way in, responses on the way out. Where no register is, a read gives zero,
// a write changes nothing and bad_access is high for a cycle. An error on the bus would stop many processors. A write
// acts one cycle after the later of its address and data, once the response before it is taken.

`default_nettype none

module sptfra_axi_lite (
    input  wire clock,
    input  wire reset,
    // Bus
    input  wire [11:0] s_awaddr,
    input  wire s_awvalid,
    output wire s_awready,
    input  wire [31:0] s_wdata,
    input  wire [3:0] s_wstrb,
    input  wire s_wvalid,
    output wire s_wready,
    output wire [1:0] s_bresp,
    output reg  s_bvalid,
    input  wire s_bready,
    input  wire [11:0] s_araddr,
    input  wire s_arvalid,
    output wire s_arready,
    output reg  [31:0] s_rdata,
    output wire [1:0] s_rresp,
    output reg  s_rvalid,
    input  wire s_rready,
    // Bank: words of four bytes
    output wire write_enable, // for one cycle, if write_mapped
    output reg  [9:0] write_word,
    output reg  [31:0] write_data,
    output wire [31:0] write_mask, // bits of the bytes that are written
    input  wire write_mapped,
    output reg  [9:0] read_word,
    input  wire [31:0] read_data, // zero if not read_mapped
    input  wire read_mapped,
    output wire bad_access // one cycle: an address without a register
);

    localparam [1:0] OKAY = 2'b00;

    // ---- Writes
    reg address_held;
    reg data_held;
    reg [3:0] strobes_held;

    wire write_acts = address_held && data_held && !s_bvalid;

    assign s_awready = !address_held;
    assign s_wready = !data_held;
    assign s_bresp = OKAY;
    assign write_enable = write_acts && write_mapped;
    assign write_mask = {{8{strobes_held[3]}}, {8{strobes_held[2]}}, {8{strobes_held[1]}}, {8{strobes_held[0]}}};

    always @(posedge clock) begin
        if (s_awvalid && s_awready) begin
            address_held <= 1'b1;
            write_word <= s_awaddr[11:2];
        end
        if (s_wvalid && s_wready) begin
            data_held <= 1'b1;
            write_data <= s_wdata;
            strobes_held <= s_wstrb;
        end
        if (s_bvalid && s_bready) begin
            s_bvalid <= 1'b0;
        end
        if (write_acts) begin
            address_held <= 1'b0;
            data_held <= 1'b0;
            s_bvalid <= 1'b1;
        end
        if (reset) begin
            address_held <= 1'b0;
            data_held <= 1'b0;
            s_bvalid <= 1'b0;
        end
    end

    // ---- Reads
    reg read_held;

    wire read_acts = read_held && !s_rvalid;

    assign s_arready = !read_held;
    assign s_rresp = OKAY;

    always @(posedge clock) begin
        if (s_arvalid && s_arready) begin
            read_held <= 1'b1;
            read_word <= s_araddr[11:2];
        end
        if (s_rvalid && s_rready) begin
            s_rvalid <= 1'b0;
        end
        if (read_acts) begin
            read_held <= 1'b0;
            s_rvalid <= 1'b1;
            s_rdata <= read_data;
        end
        if (reset) begin
            read_held <= 1'b0;
            s_rvalid <= 1'b0;
        end
    end

    assign bad_access = (write_acts && !write_mapped) || (read_acts && !read_mapped);

    // Registers are whole words
    wire _unused = &{1'b0, s_awaddr[1:0], s_araddr[1:0]};

endmodule

`default_nettype wire
