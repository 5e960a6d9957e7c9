// SPDX-License-Identifier: MIT OR Apache-2.0
// Stub for a generated core, small enough to check by hand: for each packet in, one of four words out:
// packet counter, number of words, their sum, the ROM word at the number of words (mod 4).
// Each test breaks one thing by a parameter.

`resetall
`timescale 1ns / 1ps
`default_nettype none

module packet_sum #(
    // Prefix of the ROM file names
    parameter ROM_DIR = "",
    // 1: withdraws tvalid while the sink stalls; 2: changes tdata; 3: never answers; 4: answers twice; 5: never ends an answer
    parameter FAULT = 0,
    // Cycles between the last word in and the first one out
    parameter DELAY = 5
) (
    input  wire        aclk,
    input  wire        aresetn,
    input  wire [31:0] s_axis_tdata,
    input  wire        s_axis_tvalid,
    output wire        s_axis_tready,
    input  wire        s_axis_tlast,
    output reg  [31:0] m_axis_tdata,
    output wire        m_axis_tvalid,
    input  wire        m_axis_tready,
    output wire        m_axis_tlast
);

    localparam [1:0] READ = 2'd0, WAIT = 2'd1, WRITE = 2'd2;

    reg [31:0] rom [0:3];
    initial $readmemh({ROM_DIR, "addend.mem"}, rom);

    reg [1:0]  state;
    reg [1:0]  beat;
    reg [7:0]  pause;
    reg        again;
    reg        hidden;
    reg [31:0] counter, length, sum, stalled;

    assign s_axis_tready = aresetn && state == READ;
    assign m_axis_tvalid = aresetn && state == WRITE && !hidden;
    assign m_axis_tlast  = beat == 2'd3 && FAULT != 5;

    always @* begin
        case (beat)
            2'd0: m_axis_tdata = counter;
            2'd1: m_axis_tdata = length;
            2'd2: m_axis_tdata = FAULT == 2 ? sum + stalled : sum;
            default: m_axis_tdata = rom[length[1:0]];
        endcase
    end

    always @(posedge aclk) begin
        case (state)
            READ: if (s_axis_tvalid) begin
                length <= length + 32'd1;
                sum    <= sum + s_axis_tdata;
                if (s_axis_tlast) begin
                    state <= FAULT == 3 ? READ : WAIT;
                    pause <= DELAY[7:0];
                end
            end
            WAIT: if (pause == 8'd0) state <= WRITE;
                  else pause <= pause - 8'd1;
            default: if (m_axis_tvalid && m_axis_tready) begin
                beat <= beat + 2'd1;
                if (m_axis_tlast) begin
                    again <= FAULT == 4 && !again;
                    if (FAULT != 4 || again) begin
                        state   <= READ;
                        counter <= counter + 32'd1;
                        length  <= 32'd0;
                        sum     <= 32'd0;
                    end
                end
            end
        endcase
        hidden  <= FAULT == 1 && m_axis_tvalid && !m_axis_tready;
        stalled <= m_axis_tvalid && !m_axis_tready ? stalled + 32'd1 : 32'd0;
        if (!aresetn) begin
            state   <= READ;
            beat    <= 2'd0;
            again   <= 1'b0;
            hidden  <= 1'b0;
            counter <= 32'd0;
            length  <= 32'd0;
            sum     <= 32'd0;
            stalled <= 32'd0;
        end
    end

endmodule

`resetall
